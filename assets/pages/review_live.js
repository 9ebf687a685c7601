/* SPDX-License-Identifier: Apache-2.0 */
/* Move the sun over a sweep: readings for every sun that was judged, and the map again for
   another brightness of the display. Without script maps and cards are complete. The numbers
   stand in the page, packed (review_live.h); review_look.js shares what is returned here. */
var liveTools=(function(){
var block=document.getElementById('live-data');
if(!(block||window.liveData)||!window.DecompressionStream||!window.Blob)return null;
var data=window.liveData||JSON.parse(block.textContent);

/* ---- numbers ---- */
function bytesOf(text){
  var digits=atob(text),out=new Uint8Array(digits.length);
  for(var i=0;i<out.length;i++)out[i]=digits.charCodeAt(i);
  return out;
}
/* The reverse of page_data.h: planes of differences, lowest bytes first. */
async function unpack(text,count,bytes){
  var stream=new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream('deflate'));
  var planes=new Uint8Array(await new Response(stream).arrayBuffer());
  var out=new Uint32Array(count);
  for(var plane=0;plane<bytes;plane++)
    for(var i=0,at=plane*count,value=0;i<count;i++,at++){
      value=value+planes[at]&255;
      out[i]|=value<<8*plane;
    }
  return out;
}
async function unpackLog(text,count){
  var codes=await unpack(text,count,2),out=new Float32Array(count),scale=Math.log(1e15)/65534;
  for(var i=0;i<count;i++)out[i]=codes[i]?1e-6*Math.exp((codes[i]-1)*scale):0;
  return out;
}
/* Three digits and more. */
function figure(v){
  if(!isFinite(v))return '∞';
  var size=Math.abs(v);
  if(size>=1e6)return (v/1e6).toPrecision(3)+' million';
  if(size>=1000)return Math.round(v).toString().replace(/\B(?=(\d{3})+$)/g,' ');
  return size===0?'0':size>=100?v.toFixed(0):size<0.01?v.toPrecision(2):v.toPrecision(3);
}

/* ---- verdicts ---- */
var PASS=0,FAIL=1,CLOSE=2,HIDDEN=3;
var CHIPS=[['good','✓ passes'],['bad','✗ fails'],['close','≈ too close to call'],
  ['hidden','∅ cannot be judged']];
/* Emitted light at level 1, its level, and what is reflected. */
function contrast(foreground,background,level,reflected){
  var bright=Math.max(foreground,background)*level+reflected;
  var dark=Math.min(foreground,background)*level+reflected;
  return dark>0?bright/dark:bright>0?Infinity:1;
}
/* Visual security S of what must not be read (vision/privacy.c). */
function security(ratio){
  return ratio>1?isFinite(ratio)?Math.log10(ratio/(ratio-1)):0:Infinity;
}
/* limit: [value, kind]; null: none is asked. The margin counts by the logarithm of the contrast
   ratio, as review/quantity.c has it. */
function marginOf(limit,ratio){
  if(!limit)return NaN;
  if(limit[1]==='visual_security')return security(ratio)/limit[0]-1;
  var asked=limit[1]==='luminance_contrast'?limit[0]+1:
    limit[1]==='modulation'?(limit[0]<1?(1+limit[0])/(1-limit[0]):Infinity):limit[0];
  if(ratio===asked)return 0;
  return isFinite(asked)?Math.log(ratio)/Math.max(Math.log(asked),0)-1:-1;
}
/* A contrast ratio in the words of the limit. */
function ratioWords(limit,ratio){
  var kind=limit?limit[1]:'contrast_ratio';
  if(kind==='luminance_contrast')return 'luminance contrast '+figure(ratio-1);
  if(kind==='visual_security')return 'visual security S '+figure(security(ratio));
  if(kind==='modulation')
    return 'modulation '+figure(isFinite(ratio)?(ratio-1)/(ratio+1):1);
  return figure(ratio)+' : 1';
}
/* A verdict at another brightness: by its figure alone. before: as it was judged, with its
   margin then; who fails for another reason than contrast goes on failing. */
function verdictAt(before,marginBefore,margin){
  if(before===HIDDEN||isNaN(margin)||before===FAIL&&marginBefore>=0)return before;
  return margin<0?FAIL:PASS;
}
function percent(v){
  return (v<0?'−':'+')+Math.abs(100*v).toFixed(Math.abs(v)<0.1?1:0)+' %';
}
function limitWords(limit){
  return limit?'required >= '+(limit[1]==='contrast_ratio'?limit[0]+' : 1':
    limit[1].replace('_',' ')+' '+limit[0]):'no limit asked';
}

/* ---- parts of the page ---- */
function make(name,kind,text){
  var e=document.createElement(name);
  if(kind)e.className=kind;
  if(text)e.textContent=text;
  return e;
}
/* A labelled slider; words(value): what stands beside it. */
function slider(into,title,options,words,changed){
  var label=make('label','slide'),input=make('input'),said=make('output');
  input.type='range';
  ['min','max','step','value'].forEach(function(name){
    if(name in options)input.setAttribute(name,options[name]);
  });
  label.append(make('span','',title),said,input);
  into.append(label);
  var one={input:input,get:function(){return +input.value;},set:function(value){
    input.value=value;
    said.textContent=words(+input.value);
    input.setAttribute('aria-valuetext',said.textContent);
  }};
  input.addEventListener('input',function(){one.set(input.value);changed(+input.value);});
  one.set(options.value);
  return one;
}
function button(into,text,pressed){
  var b=make('button','plain',text);
  b.type='button';
  b.addEventListener('click',pressed);
  into.append(b);
  return b;
}
/* Chip, contrast, limit; and a list of facts. */
function answer(){
  var box=make('div','live-answer');
  box.setAttribute('aria-live','polite');
  box.tell=function(verdict,ratio,limit,facts,note){
    var chip=CHIPS[verdict],margin=marginOf(limit,ratio),list=make('dl','facts');
    var said=make('p','live-said');
    said.append(make('span','chip '+chip[0],chip[1]),' ');
    if(verdict!==HIDDEN){
      said.append(make('b','',ratioWords(limit,ratio)),
        make('span','sub',limitWords(limit)+(isNaN(margin)?'':', '+percent(margin))));
      said.dataset.contrast=ratio;
      said.dataset.margin=margin;
    }
    said.dataset.verdict=verdict;
    facts.forEach(function(fact){
      list.append(make('dt','',fact[0]),make('dd','',fact[1]));
    });
    box.replaceChildren(said,list);
    if(note)box.append(note);
  };
  return box;
}

return {data:data,bytesOf:bytesOf,unpack:unpack,unpackLog:unpackLog,figure:figure,PASS:PASS,
  FAIL:FAIL,CLOSE:CLOSE,HIDDEN:HIDDEN,contrast:contrast,marginOf:marginOf,
  verdictAt:verdictAt,make:make,slider:slider,button:button,answer:answer};
})();

(function(){
if(!liveTools)return;
var t=liveTools,make=t.make;
var AMBIENTS=['night','twilight','day','sun on the display'];

/* ---- the suns of a condition, and what a sweep found of each ---- */
var skies=[];
async function skyOf(id){
  var s=t.data.skies[id],n=s.count;
  var azimuth=await t.unpack(s.azimuth,n,2),elevation=await t.unpack(s.elevation,n,2);
  var sky={count:n,year:s.year,minutes:s.minutes,headings:s.headings,
    azimuth:Float32Array.from(azimuth,function(v){return v/100;}),
    elevation:Float32Array.from(elevation,function(v){return v/100-90;})};
  if(!s.year)return sky;
  sky.step=await t.unpack(s.step,n,4);
  sky.heading=await t.unpack(s.heading,n,1);
  sky.days=new Date(Date.UTC(s.year,1,29)).getUTCMonth()===1?366:365;
  sky.stepsADay=Math.round(1440/s.minutes);
  sky.at=new Int32Array(sky.days*sky.stepsADay*s.headings.length).fill(-1);
  for(var i=0;i<n;i++)sky.at[sky.step[i]*s.headings.length+sky.heading[i]]=i;
  return sky;
}
async function sweepOf(found){
  if(!skies[found.sky])skies[found.sky]=skyOf(found.sky);
  var sky=await skies[found.sky],n=sky.count;
  var names=['reflected','mirror','level','lux'],sweep={found:found,sky:sky};
  for(var i=0;i<4;i++){
    var text=found[names[i]]; /* or the number of the sweep that has the same */
    if(typeof text==='number')text=t.data.sweeps[text][names[i]];
    sweep[names[i]]=await t.unpackLog(text,n);
  }
  sweep.state=await t.unpack(found.state,n,1);
  return sweep;
}
/* One sun at a brightness: factor times that of the review. */
function reading(sweep,i,factor){
  var found=sweep.found,verdict=sweep.state[i]&3,ambient=sweep.state[i]>>2;
  var limit=found.limits[ambient],level=sweep.level[i];
  function ratioAt(level){
    return t.contrast(found.foreground,found.background,level,sweep.reflected[i]);
  }
  var ratio=ratioAt(level*factor),margin=t.marginOf(limit,ratio);
  if(factor!==1)verdict=t.verdictAt(verdict,t.marginOf(limit,ratioAt(level)),margin);
  return {verdict:verdict,ratio:ratio,margin:margin,limit:limit,ambient:ambient,
    level:level*factor};
}

/* ---- the map ---- */
function turn(degrees){return degrees-360*Math.floor(degrees/360);}
function Map(area){
  var d=area.dataset;
  this.area=area;
  this.columns=+d.columns;this.rows=+d.rows;
  this.first=+d.first;this.step=+d.step;this.low=+d.low;this.rise=+d.rise;
  this.words=d.words.split('|');
}
/* Shares of the way from the left, and from below. */
Map.prototype.place=function(azimuth,elevation){
  var left=this.first-this.step/2;
  return [turn(azimuth-left)/this.step/this.columns,
    ((elevation-this.low)/this.rise+0.5)/this.rows];
};
Map.prototype.sunAt=function(event){
  var box=this.area.getBoundingClientRect();
  var x=(event.clientX-box.left)/box.width,y=(box.bottom-event.clientY)/box.height;
  return [this.first+(x*this.columns-0.5)*this.step,this.low+(y*this.rows-0.5)*this.rise];
};
function nearest(sky,azimuth,elevation){
  var best=-1,least=Infinity,narrow=Math.cos(elevation*Math.PI/180);
  for(var i=0;i<sky.count;i++){
    var across=(turn(sky.azimuth[i]-azimuth+180)-180)*narrow,up=sky.elevation[i]-elevation;
    var distance=across*across+up*up;
    if(distance<least){least=distance;best=i;}
  }
  return best;
}

/* ---- the map's colours, as review_map.c has them ---- */
var WORST=[0.50,0.06,0.09],FAILING=[0.97,0.68,0.50],PASSING=[0.86,0.93,0.97],
  BEST=[0.45,0.64,0.78],TOO_CLOSE=[0.98,0.84,0.33],NOT_SEEN=[0.36,0.34,0.42];
function mix(a,b,share){
  var part=Math.min(Math.max(share,0),1);
  return a.map(function(v,i){return v+part*(b[i]-v);});
}
function colourOf(verdict,margin){
  if(verdict===t.CLOSE)return TOO_CLOSE;
  if(verdict===t.HIDDEN)return NOT_SEEN;
  if(verdict===t.FAIL)return mix(FAILING,WORST,isNaN(margin)?0.5:-margin);
  return mix(PASSING,BEST,isNaN(margin)?0.5:margin);
}
/* The worst sun of each cell. */
function worstOf(map,sweep,factor){
  var cells=new Array(map.columns*map.rows).fill(null);
  for(var i=0;i<sweep.sky.count;i++){
    var place=map.place(sweep.sky.azimuth[i],sweep.sky.elevation[i]);
    var column=Math.floor(place[0]*map.columns)%map.columns,row=Math.floor(place[1]*map.rows);
    if(row<0||row>=map.rows)continue;
    var one=reading(sweep,i,factor),at=row*map.columns+column;
    if(!cells[at]||one.ratio<cells[at].ratio)cells[at]=one;
  }
  return cells;
}
function borderOf(map,cells){
  var d='',columns=map.columns,rows=map.rows;
  function fails(column,row){
    var cell=column>=0&&column<columns&&row>=0&&row<rows?cells[row*columns+column]:null;
    return !!cell&&cell.verdict===t.FAIL;
  }
  for(var row=0;row<=rows;row++)for(var column=0;column<=columns;column++){
    if(fails(column,row)!==fails(column,row-1))d+='M'+column+' '+(rows-row)+'h1';
    if(fails(column,row)!==fails(column-1,row))d+='M'+column+' '+(rows-row)+'v-1';
  }
  return d;
}
function Painter(map){
  this.map=map;
  this.image=map.area.querySelector('svg.cells image');
  this.border=map.area.querySelector('svg.cells .border');
  this.before=[this.image.getAttribute('href'),this.border.getAttribute('d')];
}
Painter.prototype.paint=function(sweep,factor){
  var map=this.map,canvas=make('canvas');
  if(factor===1){
    this.image.setAttribute('href',this.before[0]);
    this.border.setAttribute('d',this.before[1]);
    return;
  }
  canvas.width=map.columns;canvas.height=map.rows;
  var context=canvas.getContext('2d'),picture=context.createImageData(map.columns,map.rows);
  var cells=worstOf(map,sweep,factor);
  cells.forEach(function(cell,i){
    var row=map.rows-1-Math.floor(i/map.columns),at=4*(row*map.columns+i%map.columns);
    var colour=cell?colourOf(cell.verdict,cell.margin):[0.74,0.76,0.78];
    for(var c=0;c<3;c++)picture.data[at+c]=Math.round(255*colour[c]);
    picture.data[at+3]=255;
  });
  context.putImageData(picture,0,0);
  this.image.setAttribute('href',canvas.toDataURL());
  this.border.setAttribute('d',borderOf(map,cells));
};

/* ---- words ---- */
var MONTHS=['January','February','March','April','May','June','July','August','September',
  'October','November','December'];
function dayWords(sky,day){
  var date=new Date(Date.UTC(sky.year,0,1+day));
  return date.getUTCDate()+' '+MONTHS[date.getUTCMonth()];
}
function clockWords(minutes){
  return Math.floor(minutes/60)+':'+('0'+Math.floor(minutes%60)).slice(-2)+' UTC';
}
function factorOf(value){return value===0?1:Math.pow(2,value);}
function factorWords(value){return '× '+t.figure(factorOf(value));}

/* ---- one sweep ---- */
function Panel(sweep,section,map){
  var panel=this;
  this.sweep=sweep;this.sky=sweep.sky;this.map=map;this.at=-1;
  this.painter=new Painter(map);
  this.box=make('div','live');
  this.box.setAttribute('role','group');
  this.box.setAttribute('aria-label','Move the sun');
  this.controls=make('div','live-controls');
  this.answer=t.answer();
  this.box.append(make('h4','','Move the sun'),this.controls,this.answer);
  section.querySelector('.sweeps').insertAdjacentElement('afterend',this.box);
  if(this.sky.year)this.addTimes(section);
  else this.addAngles();
  this.factor=t.slider(this.controls,'Display brightness',
    {min:-4,max:4,step:0.125,value:0},factorWords,function(){panel.show(true);});
  var buttons=make('div','live-buttons');
  this.controls.append(buttons);
  t.button(buttons,'Worst sun',function(){
    panel.factor.set(0);
    panel.painter.paint(sweep,1);
    panel.move(sweep.found.worst);
  });
  this.addSun();
  this.addPictures();
  this.move(sweep.found.worst);
}
Panel.prototype.addAngles=function(){
  var panel=this,map=this.map,last=map.first+(map.columns-1)*map.step;
  function moved(){panel.move(nearest(panel.sky,panel.azimuth.get(),panel.elevation.get()));}
  function degrees(v){return v.toFixed(1)+'°';}
  this.azimuth=t.slider(this.controls,'Azimuth of the sun',
    {min:map.first,max:last,step:map.step,value:map.first},degrees,moved);
  this.elevation=t.slider(this.controls,'Height of the sun',
    {min:map.low,max:map.low+(map.rows-1)*map.rise,step:map.rise,value:map.low},degrees,moved);
};
Panel.prototype.addTimes=function(section){
  var panel=this,sky=this.sky;
  function moved(){panel.moveTo(panel.day.get(),panel.hour.get(),+panel.heading.value);}
  this.day=t.slider(this.controls,'Day',{min:0,max:sky.days-1,step:1,value:0},
    function(v){return dayWords(sky,v);},moved);
  this.hour=t.slider(this.controls,'Hour',{min:0,max:sky.stepsADay-1,step:1,value:0},
    function(v){return clockWords((v+0.5)*sky.minutes);},moved);
  var label=make('label','slide'),select=make('select');
  sky.headings.forEach(function(heading,i){
    var option=make('option','',heading+'°');
    option.value=i;
    select.append(option);
  });
  label.append(make('span','','Heading'),select);
  this.controls.append(label);
  select.addEventListener('change',moved);
  this.heading=select;
  this.path=document.createElementNS('http://www.w3.org/2000/svg','path');
  this.path.setAttribute('class','day');
  this.map.area.querySelector('svg.cells').append(this.path);
  this.calendar=section.querySelector('.area[data-kind=calendar]');
  if(!this.calendar)return;
  this.mark=make('i','live-mark');
  this.calendar.append(this.mark);
  follow(this.calendar,function(event){
    var box=panel.calendar.getBoundingClientRect();
    var x=(event.clientX-box.left)/box.width,y=(box.bottom-event.clientY)/box.height;
    var day=Math.floor(x*sky.days),step=Math.floor(y*sky.stepsADay);
    panel.moveTo(Math.min(Math.max(day,0),sky.days-1),
      Math.min(Math.max(step,0),sky.stepsADay-1),+panel.heading.value);
  });
};
/* Pressed and moved, by mouse, pen or finger. */
function follow(area,moved){
  var held=false;
  area.addEventListener('pointerdown',function(event){
    if(event.button)return;
    held=true;
    if(area.setPointerCapture)area.setPointerCapture(event.pointerId);
    moved(event);
  });
  area.addEventListener('pointermove',function(event){if(held)moved(event);});
  ['pointerup','pointercancel'].forEach(function(name){
    area.addEventListener(name,function(){held=false;});
  });
}
Panel.prototype.addSun=function(){
  var panel=this,sun=make('button','live-sun');
  sun.type='button';
  this.sun=sun;
  this.map.area.append(sun);
  follow(this.map.area,function(event){
    var at=panel.map.sunAt(event);
    panel.move(nearest(panel.sky,at[0],at[1]));
    sun.focus({preventScroll:true});
  });
  sun.addEventListener('keydown',function(event){
    var way={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,1],ArrowDown:[0,-1]}[event.key];
    if(!way)return;
    event.preventDefault();
    panel.step(way[0],way[1]);
  });
};
/* By keys: over the map by a cell; over a year by a step of time and
   by a day. */
Panel.prototype.step=function(right,up){
  var sky=this.sky,map=this.map;
  if(!sky.year){
    this.move(nearest(sky,sky.azimuth[this.at]+right*map.step,
      Math.max(sky.elevation[this.at]+up*map.rise,-90)));
    return;
  }
  var day=this.day.get()+up,hour=this.hour.get()+right;
  if(hour<0||hour>=sky.stepsADay){day+=right;hour-=right*sky.stepsADay;}
  this.moveTo((day+sky.days)%sky.days,hour,+this.heading.value);
};
/* Suns of which there is a picture, by the same eye. */
Panel.prototype.addPictures=function(){
  var panel=this;
  this.seen=this.sweep.found.seen.map(function(one){
    var ring=make('i','live-ring'),place=panel.map.place(one[1],one[2]);
    ring.style.left=100*place[0]+'%';
    ring.style.bottom=100*place[1]+'%';
    ring.title='there is a picture of this sun';
    panel.map.area.append(ring);
    return {card:one[0],at:nearest(panel.sky,one[1],one[2])};
  });
};
Panel.prototype.move=function(i){
  var sky=this.sky;
  if(i<0)return;
  if(sky.year){
    this.moveTo(Math.floor(sky.step[i]/sky.stepsADay),sky.step[i]%sky.stepsADay,
      sky.heading[i]);
    return;
  }
  this.at=i;
  this.azimuth.set(this.map.first+
    turn(sky.azimuth[i]-this.map.first+this.map.step/2)-this.map.step/2);
  this.elevation.set(sky.elevation[i]);
  this.show(false);
};
Panel.prototype.moveTo=function(day,hour,heading){
  var sky=this.sky;
  this.day.set(day);
  this.hour.set(hour);
  this.heading.value=heading;
  this.at=sky.at[(day*sky.stepsADay+hour)*sky.headings.length+heading];
  this.path.setAttribute('d',this.pathOf(day,heading));
  if(this.mark){
    this.mark.style.left=100*(day+0.5)/sky.days+'%';
    this.mark.style.bottom=100*(hour+0.5)/sky.stepsADay+'%';
  }
  this.show(false);
};
Panel.prototype.pathOf=function(day,heading){
  var sky=this.sky,d='',last=null;
  for(var hour=0;hour<sky.stepsADay;hour++){
    var i=sky.at[(day*sky.stepsADay+hour)*sky.headings.length+heading];
    if(i<0)continue;
    var place=this.map.place(sky.azimuth[i],sky.elevation[i]);
    d+=(last!==null&&Math.abs(place[0]-last)<0.5?'L':'M')+
      (place[0]*this.map.columns).toFixed(2)+' '+((1-place[1])*this.map.rows).toFixed(2);
    last=place[0];
  }
  return d;
};
Panel.prototype.where=function(){
  var sky=this.sky,azimuth=turn(sky.azimuth[this.at]);
  return sky.elevation[this.at].toFixed(1)+'° high, '+
    this.map.words[Math.round(azimuth/45)%8]+', azimuth '+azimuth.toFixed(1)+'°';
};
Panel.prototype.link=function(){
  for(var i=0;i<this.seen.length;i++)
    if(this.seen[i].at===this.at){
      var link=make('a','','Look at the picture of this sun');
      link.href=(document.getElementById(this.seen[i].card)?'':
        /cases\.html$/.test(location.pathname)?'index.html':'cases.html')+
        '#'+this.seen[i].card;
      return link;
    }
  return null;
};
Panel.prototype.show=function(isRepainted){
  var value=this.factor.get(),factor=factorOf(value),sun=this.sun,sweep=this.sweep,i=this.at;
  if(isRepainted)this.painter.paint(sweep,factor);
  sun.hidden=i<0;
  this.answer.dataset.sun=i;
  if(i<0){
    this.answer.replaceChildren(make('p','live-said','The sun is below the horizon: '+
      'not judged.'));
    return;
  }
  var place=this.map.place(this.sky.azimuth[i],this.sky.elevation[i]);
  var one=reading(sweep,i,factor);
  sun.style.left=100*place[0]+'%';
  sun.style.bottom=100*place[1]+'%';
  sun.setAttribute('aria-label','The sun: '+this.where()+'; arrow keys move it');
  this.answer.tell(one.verdict,one.ratio,one.limit,[
    ['Sun',this.where()],
    ['Ambient',AMBIENTS[one.ambient]+', '+t.figure(sweep.lux[i])+' lx on the display'],
    ['Reflected',t.figure(sweep.reflected[i])+' cd/m², of it the sun as in a mirror '+
      t.figure(sweep.mirror[i])],
    ['Level',(100*one.level).toPrecision(3)+' % of what was measured'+
      (factor===1?'':'; judged by its figure, without an interval')]],this.link());
};

/* ---- all sweeps, each when it comes into sight ---- */
function begin(found){
  var card=document.getElementById('s'+found.id),section=card&&card.closest('section');
  var area=section&&section.querySelector('.area[data-kind=map]');
  if(!area)return;
  whenSeen(area,function(){
    sweepOf(found).then(function(sweep){
      if(sweep.sky.count)new Panel(sweep,section,new Map(area));
    });
  });
}
function whenSeen(element,act){
  if(!window.IntersectionObserver){act();return;}
  var watch=new IntersectionObserver(function(seen){
    if(!seen.some(function(one){return one.isIntersecting;}))return;
    watch.disconnect();
    act();
  },{rootMargin:'400px'});
  watch.observe(element);
}
liveTools.whenSeen=whenSeen;
t.data.sweeps.forEach(begin);
})();
