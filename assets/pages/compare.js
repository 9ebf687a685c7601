/* SPDX-License-Identifier: Apache-2.0 */
/* Looking at a pair: slider, blink, side by side, maps, zoom, values under the pointer. Needs
   `ramps`, {"signed": "rrggbb...", "plain": "rrggbb..."}. Without script the pictures stand one
   beside the other. Embedded by the build, behind page.js. */
(function(){
function el(tag,name,parent,text){
  var e=document.createElement(tag);if(name)e.className=name;if(text)e.textContent=text;
  if(parent)parent.appendChild(e);return e;
}
function button(parent,text,act){
  var b=el('button','',parent,text);b.type='button';b.addEventListener('click',act);return b;
}
function press(group,chosen){
  group.forEach(function(b){b.setAttribute('aria-pressed',b===chosen);});
}
function short(v){return String(+v.toPrecision(3));}
var codes={};
['plain','signed'].forEach(function(name){
  codes[name]={};
  for(var i=0;i<256;i++)codes[name][ramps[name].substr(6*i,6)]=i/255;
});
function hex(d,i){
  return ((1<<24)|(d[i]<<16)|(d[i+1]<<8)|d[i+2]).toString(16).slice(1);
}
function pixels(shot){
  if(shot.data)return shot.data;
  var c=document.createElement('canvas'),img=shot.img;
  c.width=img.naturalWidth;c.height=img.naturalHeight;
  var g=c.getContext('2d',{willReadFrequently:true});g.drawImage(img,0,0);
  shot.data=g.getImageData(0,0,c.width,c.height).data;
  return shot.data;
}
function valueAt(shot,x,y){
  var d=pixels(shot),i=4*(y*shot.img.naturalWidth+x),f=shot.figure.dataset;
  if(!f.ramp)return shot.title+' '+d[i]+' '+d[i+1]+' '+d[i+2];
  var t=codes[f.ramp][hex(d,i)];
  if(t===undefined)return '';
  var v=+f.low+t*(f.high-f.low),end=t===1||(t===0&&f.ramp==='signed')?' or beyond':'';
  if(f.kind==='p')return 'p '+Math.pow(10,-v).toPrecision(2)+end;
  return shot.title+' '+(f.ramp==='signed'&&v>0?'+':'')+short(v)+
    (f.unit?' '+f.unit:'')+end;
}
function build(pair){
  if(pair.dataset.built)return;
  pair.dataset.built=1;
  var box=pair.querySelector('.shots');
  if(!box||!box.dataset.factor)return;
  var shots={},maps=[];
  box.querySelectorAll('figure').forEach(function(f){
    var s={figure:f,img:f.querySelector('img'),title:f.querySelector('h3').textContent};
    shots[f.dataset.kind]=s;
    if(f.dataset.ramp)maps.push(f.dataset.kind);
  });
  var a=shots.reference,b=shots.test,factor=+box.dataset.factor||1;
  var stage=el('div','stage'),bar=el('div','bar',stage),panes=el('div','panes',stage);
  var read=el('div','read',stage),under=el('div','under',stage);
  box.parentNode.insertBefore(stage,box);
  var modes=el('div','group',bar),zooms=el('div','group',bar);
  var slide=el('input','',bar),flip=button(bar,'Pause',function(){turn(!running);});
  flip.className='solo';
  slide.type='range';slide.min=0;slide.max=1000;slide.value=500;
  slide.setAttribute('aria-label','where the reference ends and the test begins');
  var views=[0,1].map(function(){
    var v={box:el('div','view',panes)};
    v.box.tabIndex=0;
    v.canvas=el('div','canvas',v.box);
    v.low=el('img','',v.canvas);v.high=el('img','',v.canvas);
    v.low.alt=v.high.alt='';v.low.draggable=v.high.draggable=false;
    v.handle=el('div','handle',v.canvas);
    v.left=el('span','tag l',v.canvas);v.right=el('span','tag r',v.canvas);
    return v;
  });
  var one=views[0],two=views[1],mode='',zoom=0,timer=0,running=false,shown=false;
  function size(){
    var w=a.img.naturalWidth,h=a.img.naturalHeight;
    if(!w)return;
    views.forEach(function(v){
      var z=zoom||Math.min(v.box.clientWidth/w,window.innerHeight*0.78/h);
      v.canvas.style.width=w*z+'px';v.canvas.style.height=h*z+'px';
      v.canvas.classList.toggle('near',z>=1.5);
    });
  }
  function place(t){
    one.high.style.clipPath='inset(0 0 0 '+100*t+'%)';
    one.handle.style.left=100*t+'%';
  }
  function show(which){
    shown=which;one.high.style.visibility=which?'visible':'hidden';
    one.left.textContent=which?'test':'reference';
  }
  function turn(on){
    clearInterval(timer);running=on;flip.textContent=on?'Pause':'Blink';
    if(on)timer=setInterval(function(){show(!shown);},700);
  }
  function set(kind,pressed){
    mode=kind;turn(false);press([].slice.call(modes.children),pressed);
    var all=kind==='all';
    box.style.display=all?'':'none';panes.style.display=all?'none':'';
    zooms.style.display=all?'none':'';read.style.display=all?'none':'';
    under.textContent='';
    slide.style.display=kind==='slider'?'':'none';
    flip.style.display=kind==='blink'?'':'none';
    two.box.style.display=kind==='side'?'':'none';
    one.box.classList.toggle('drag',kind==='slider');
    one.handle.style.display=kind==='slider'?'':'none';
    one.right.textContent=kind==='slider'?'test':'';
    one.left.textContent=kind==='slider'||kind==='side'?'reference':'';
    views.forEach(function(v){
      v.right.style.display=v.right.textContent?'':'none';
      v.handle.style.display=v===one&&kind==='slider'?'':'none';
    });
    one.high.style.clipPath='none';one.high.style.visibility='visible';
    two.high.style.visibility='hidden';two.right.style.display='none';
    var map=shots[kind];
    one.low.src=map?map.img.src:a.img.src;
    one.high.src=map?map.img.src:kind==='side'?a.img.src:b.img.src;
    two.low.src=b.img.src;two.left.textContent='test';
    one.left.style.display=map?'none':'';
    if(kind==='slider')place(slide.value/1000);
    if(kind==='blink'){
      show(false);turn(!window.matchMedia('(prefers-reduced-motion: reduce)').matches);
    }
    if(map)map.figure.querySelectorAll('.scale,figcaption').forEach(function(e){
      under.appendChild(e.cloneNode(true));
    });
    size();
  }
  [['slider','Slider'],['blink','Blink'],['side','Side by side']].concat(
    maps.map(function(k){return [k,shots[k].title];}),[['all','All']]).forEach(function(m){
    var made=button(modes,m[1],function(){set(m[0],made);});
  });
  [['Fit',0],['100 %',1],['200 %',2],['400 %',4],['800 %',8]].forEach(function(m){
    var made=button(zooms,m[0],function(){
      var v=one.box,x=(v.scrollLeft+v.clientWidth/2)/v.scrollWidth;
      var y=(v.scrollTop+v.clientHeight/2)/v.scrollHeight;
      zoom=m[1];press([].slice.call(zooms.children),made);size();
      v.scrollLeft=x*v.scrollWidth-v.clientWidth/2;
      v.scrollTop=y*v.scrollHeight-v.clientHeight/2;
    });
  });
  press([].slice.call(zooms.children),zooms.children[0]);
  slide.addEventListener('input',function(){place(slide.value/1000);});
  function drag(event){
    if(mode!=='slider'||!(event.buttons&1))return;
    var r=one.canvas.getBoundingClientRect();
    var t=Math.max(0,Math.min(1,(event.clientX-r.left)/r.width));
    slide.value=1000*t;place(t);
  }
  one.canvas.addEventListener('pointerdown',drag);
  views.forEach(function(v,i){
    v.box.addEventListener('scroll',function(){
      var w=views[1-i].box;
      if(mode==='side'){w.scrollLeft=v.box.scrollLeft;w.scrollTop=v.box.scrollTop;}
    });
    v.box.addEventListener('keydown',function(event){
      if(event.key===' '&&mode==='blink'){turn(false);show(!shown);event.preventDefault();}
    });
    v.canvas.addEventListener('pointermove',function(event){
      drag(event);
      var r=v.canvas.getBoundingClientRect(),w=a.img.naturalWidth,h=a.img.naturalHeight;
      var x=Math.floor((event.clientX-r.left)/r.width*w);
      var y=Math.floor((event.clientY-r.top)/r.height*h);
      if(x<0||y<0||x>=w||y>=h){read.textContent='';return;}
      read.textContent=['pixel '+x*factor+', '+y*factor].concat(
        ['reference','test'].concat(maps).map(function(k){return valueAt(shots[k],x,y);})
          .filter(Boolean)).join('  \u00b7  ');
    });
    v.canvas.addEventListener('pointerleave',function(){read.textContent='';});
  });
  window.addEventListener('resize',size);
  a.img.addEventListener('load',size);
  set('slider',modes.children[0]);
}
document.querySelectorAll('.pair').forEach(function(pair){
  if(pair.tagName!=='DETAILS'||pair.open)build(pair);
  pair.addEventListener('toggle',function(){if(pair.open)build(pair);});
});
var only=document.getElementById('only');
if(only){
  only.closest('p').hidden=false;
  only.addEventListener('change',function(){
    document.body.classList.toggle('only',only.checked);
  });
}
})();
