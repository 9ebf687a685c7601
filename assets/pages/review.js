/* SPDX-License-Identifier: Apache-2.0 */
/* What the reader may point at: of a map the row of the step that its cell shows, as it was judged;
   of a calendar how many headings fail. Nothing is judged here, and without script both are
   complete (src/review/output/review_map.c).

   data-values: JSON, deflated, in base64. Lists of a value a cell, from the lower left. */
(function(){
async function unpack(text){
  var bytes=Uint8Array.from(atob(text),function(c){return c.charCodeAt(0);});
  var stream=new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return JSON.parse(await new Response(stream).text());
}
function make(name,kind,text){
  var e=document.createElement(name);
  e.className=kind;
  e.append(text);
  return e;
}
/* On a telephone each cell of these tables says its column. */
[].forEach.call(document.querySelectorAll('table.variants,.verdicts table'),function(table){
  var heads=table.tHead?table.tHead.rows[0].cells:[];
  [].forEach.call(table.tBodies,function(body){
    [].forEach.call(body.rows,function(row){
      [].forEach.call(row.cells,function(cell,i){
        if(heads[i]&&row.className!=='help')cell.dataset.name=heads[i].textContent;
      });
    });
  });
  table.classList.add('named');
});

/* ---- what is said of a cell ---- */
function ofMap(d,v,i){
  return [make('span','chip '+v.kind[i],v.verdict[i]),' ',make('b','',v.contrast[i]+' : 1'),' ('+
    v.range[i]+'), margin '+v.margin[i]+' · sun '+v.elevation[i]+'° high, '+
    v.where[i]+', azimuth '+v.azimuth[i]+'°'+(v.when[i]?', '+v.when[i]:'')+' · '+
    v.lux[i]+' lx on the display · reflected '+v.reflected[i]+
    ' cd/m², of it the sun as in a mirror '+v.mirror[i]+' · brightness level '+v.level[i]];
}
function ofCalendar(d,v,i){
  var day=new Date(Date.UTC(+d.year,0,1+i%d.columns)),minutes=Math.floor(i/d.columns)*1440/d.rows;
  return [day.toLocaleDateString('en-GB',{day:'numeric',month:'long',timeZone:'UTC'})+', '+
    Math.floor(minutes/60)+':'+('0'+Math.round(minutes%60)).slice(-2)+' UTC: '+
    (v[i]===null?'sun below the horizon, or no answer':
      v[i]?'fails for '+v[i]+' of '+d.headings+' heading'+(+d.headings===1?'':'s'):'passes')];
}
/* Of a map the nearest cell that has a step. */
function nearest(d,v,column,row){
  var best=-1,least=Infinity;
  if(d.kind!=='map')return row*d.columns+column;
  for(var i=0;i<v.azimuth.length;i++){
    if(v.azimuth[i]===null)continue;
    var turns=(i%d.columns-column)*d.step/360,up=(Math.floor(i/d.columns)-row)*d.rise;
    var across=360*(turns-Math.round(turns))*
      Math.cos((+d.low+row*d.rise)*Math.PI/180),apart=across*across+up*up;
    if(apart<least){least=apart;best=i;}
  }
  return best;
}

/* ---- click, drag and arrow keys ---- */
async function follow(area){
  var d=area.dataset,columns=+d.columns,rows=+d.rows,v=await unpack(d.values);
  var isMap=d.kind==='map',at=-1;
  var read=make('div','read',isMap?'Click, drag or use arrow keys: the figures of one sun.':
    'Click, drag or use arrow keys: how many headings fail.');
  var mark=make('i','picked','');
  function pick(column,row){
    at=nearest(d,v,column,row);
    if(at<0)return;
    mark.style.left=100*(at%columns+0.5)/columns+'%';
    mark.style.bottom=100*(Math.floor(at/columns)+0.5)/rows+'%';
    area.append(mark);
    read.dataset.cell=at;
    read.replaceChildren.apply(read,(isMap?ofMap:ofCalendar)(d,v,at));
  }
  function inside(value,count){return Math.min(Math.max(Math.floor(value),0),count-1);}
  function point(event){
    var box=area.getBoundingClientRect();
    if(event.type==='pointerdown'?event.button:!event.buttons)return;
    pick(inside((event.clientX-box.left)/box.width*columns,columns),
      inside((box.bottom-event.clientY)/box.height*rows,rows));
  }
  read.setAttribute('aria-live','polite');
  area.parentElement.insertAdjacentElement('afterend',read);
  area.tabIndex=0;
  area.addEventListener('pointerdown',point);
  area.addEventListener('pointermove',point);
  area.addEventListener('keydown',function(event){
    var way={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,1],ArrowDown:[0,-1]}[event.key];
    if(!way)return;
    event.preventDefault();
    pick((Math.max(at,0)%columns+way[0]+columns)%columns,
      inside(Math.max(at,0)/columns+way[1],rows));
  });
}
if(window.DecompressionStream)
  [].forEach.call(document.querySelectorAll('.area[data-values]'),follow);
})();
